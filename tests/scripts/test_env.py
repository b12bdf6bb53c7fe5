"""The environment: scripts/env chooses and passes on, and the package list covers the imports."""

import ast
import hashlib
import itertools
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LISTS = ("packages", "packages.studies")


def listed(*names):
    """Packages of lists in `scripts/`."""
    lines = (line for name in names for line in (ROOT / "scripts" / name).read_text().splitlines())
    return [words[0] for line in lines if (words := line.partition("#")[0].split())]


PACKAGES = listed(*LISTS)
# modules that come with a package of another name
PACKAGE_OF = dict.fromkeys(["basix", "ffcx", "ufl"], "python3-dolfinx") | {
    "PIL": "python3-pil",
    "vtkmodules": "python3-pyvista",
    "xdist": "python3-pytest-xdist",
}


OPTIONAL = {"pandas", "distributed", "emcee", "shtab"}
"""Modules that are used where they are installed, and asked for by a message elsewhere."""


def call(route, *command, path=None, cache=None, **options):
    """Run a command by one route, with a directory of commands put before those of the machine."""
    environment = os.environ | {"THERMOWEAR_ENV": route}
    if path is not None:
        environment["PATH"] = f"{path}:{environment['PATH']}"
    if cache is not None:
        environment["XDG_CACHE_HOME"] = str(cache)
    return subprocess.run(
        [ROOT / "scripts/env", *command],
        env=environment,
        text=True,
        capture_output=True,
        timeout=60,
        **options,
    )


def fake(directory, name, body):
    """A shell script that stands for a command."""
    directory.mkdir(exist_ok=True)
    (directory / name).write_text(f"#!/bin/sh\n{body}\n")
    (directory / name).chmod(0o755)
    return directory


def third_party(*folders):
    """Top-level names that the Python files in folders import, without Python's and our own."""
    names = set()
    for file in (file for folder in folders for file in (ROOT / folder).rglob("*.py")):
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.Import):
                names.update(alias.name for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and not node.level:
                names.add(node.module)
    top = {name.partition(".")[0] for name in names}
    return top - sys.stdlib_module_names - {"thermowear", "tests"} - OPTIONAL


def test_command_is_passed_unharmed(tmp_path):
    words = ["two words", 'it\'s "quoted"', "µ $HOME *", ""]
    code = "import os, sys; print([os.getcwd(), sys.stdin.read(), *sys.argv[1:]]); sys.exit(7)"
    done = call("direct", "python3", "-c", code, *words, cwd=tmp_path, input="in")
    assert ast.literal_eval(done.stdout) == [str(tmp_path), "in", *words]
    assert (done.returncode, done.stderr) == (7, "")


def test_package_is_found_from_any_directory(tmp_path):
    code = "import thermowear; print(thermowear.__file__)"
    done = call("direct", "python3", "-c", code, cwd=tmp_path)
    assert Path(done.stdout.strip()) == ROOT / "thermowear/__init__.py", done.stderr


@pytest.mark.parametrize(
    "python", [f'exec {shlex.quote(sys.executable)} -I -S "$@"', "exit 1"], ids=["bare", "broken"]
)
def test_python_without_dolfinx_is_one_clear_message(tmp_path, python):
    done = call("direct", "true", path=fake(tmp_path, "python3", python))
    assert (done.returncode, done.stdout) == (1, "")
    (line,) = done.stderr.splitlines()
    assert line.startswith(f"scripts/env: python3 ({tmp_path}/python3) lacks ")
    assert ("dolfinx, gmsh" in line) == ("-S" in python)


def test_unknown_route_is_one_clear_message():
    done = call("magic", "true")
    assert done.returncode == 1
    assert done.stderr == (
        "scripts/env: THERMOWEAR_ENV is magic; it may be direct, container or root\n"
    )


def test_no_engine_is_one_clear_message(tmp_path):
    path = fake(fake(tmp_path / "bin", "docker", "exit 1"), "podman", "exit 1").resolve()
    done = call("container", "true", path=path, cache=tmp_path / "cache")
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert "neither docker nor podman answers" in line


@pytest.mark.skipif(os.geteuid() == 0, reason="root writes anywhere")
def test_cache_that_cannot_be_written(tmp_path):
    tmp_path.chmod(0o555)
    done = call("container", "true", cache=tmp_path)
    assert done.returncode == 1
    assert "set XDG_CACHE_HOME" in done.stderr


def test_container_sees_project_and_directory_of_the_caller(tmp_path):
    here, cache = tmp_path / "a case", tmp_path / "cache"
    here.mkdir()
    log = tmp_path / "log"
    # an engine without any image, which writes down what else it is asked
    body = f"""[ "$2" = inspect ] && exit 1; printf '%s\\n' "$@" >> {shlex.quote(str(log))}"""
    path = fake(tmp_path / "bin", "docker", body)
    done = call("container", "python3", "-c", "two words", path=path, cache=cache, cwd=here)
    assert done.returncode == 0, done.stderr
    asked = log.read_text().splitlines()
    run = asked.index("run")
    assert asked[:4] == ["info", "build", "--target", "environment"]
    assert asked[4:7] == ["--build-arg", "WITH=", "--tag"]
    assert asked[8:run] == [str(ROOT)]
    image, asked = asked[7], asked[run:]
    options = list(itertools.pairwise(asked))
    for volume in (ROOT, here, next((cache / "thermowear").glob("container-*"))):
        assert ("--volume", f"{volume}:{volume}") in options
    assert ("--workdir", str(here)) in options
    assert ("--user", f"{os.getuid()}:{os.getgid()}") in options
    assert ("--env", f"PYTHONPATH={ROOT}") in options
    assert asked[-4:] == [image, "python3", "-c", "two words"]


def asked_of_root(tmp_path, **variables):
    """What the root route asks to be run, with trees of all packages in the cache."""
    key = [*listed("packages")]
    if variables.get("THERMOWEAR_WITH"):
        key += listed(f"packages.{variables['THERMOWEAR_WITH']}")
    key += variables.get("THERMOWEAR_EXTRA_PACKAGES", "").split()
    digest = hashlib.sha256(("\n".join(sorted(set(key))) + "\n").encode()).hexdigest()[:12]
    tree = f"root-{variables.get('THERMOWEAR_SUITE', 'trixie')}-{digest}"
    (tmp_path / "cache" / "thermowear" / tree).mkdir(parents=True)
    path = fake(fake(tmp_path / "bin", "apt-get", "exit 1"), "unshare", """printf '%s\\n' "$@" """)
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path / "cache")} | variables
    environment["PATH"] = f"{path}:{environment['PATH']}"
    done = subprocess.run(
        [ROOT / "scripts/env", "echo", "two words"],
        env=environment,
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return tree, done.stdout.splitlines()


@pytest.mark.skipif(os.geteuid() != 0, reason="only root enters a tree")
@pytest.mark.parametrize(
    "variables",
    [
        {"THERMOWEAR_ENV": "root"},
        {"THERMOWEAR_ENV": "root", "THERMOWEAR_WITH": "studies"},
        {"THERMOWEAR_ENV": "root", "THERMOWEAR_WITH": "docs"},
        {"THERMOWEAR_EXTRA_PACKAGES": "python3-getfem"},  # a tree although python3 has it all
        {"THERMOWEAR_SUITE": "unstable", "THERMOWEAR_WITH": "studies"},
    ],
    ids=lambda variables: " ".join(variables.values()),
)
def test_root_enters_the_tree_of_its_packages(tmp_path, variables):
    """requirement: each list of packages and each suite has a tree of its own, made once."""
    tree, asked = asked_of_root(tmp_path, **variables)
    assert asked[:3] == ["--mount", "--propagation", "private"]
    inside = asked.index("--inside")
    assert asked[inside + 1] == str(tmp_path / "cache" / "thermowear" / tree)
    assert asked[inside + 2 :] == ["echo", "two words"]


def test_without_any_route_the_message_names_all(tmp_path):
    """requirement: no packages, no engine, no Debian: what to do, in one message."""
    tools = "bash cat cut dirname env grep mkdir sed sha256sum sort timeout tr".split()
    path = fake(tmp_path / "bin", "python3", "exit 1")
    for tool in tools:
        (path / tool).symlink_to(shutil.which(tool))
    done = subprocess.run(
        [ROOT / "scripts/env", "true"],
        env={"PATH": str(path), "HOME": str(tmp_path), "XDG_CACHE_HOME": str(tmp_path)},
        text=True,
        capture_output=True,
        timeout=60,
    )
    assert done.returncode == 1
    for remedy in ("scripts/packages", "docker or podman", "as root"):
        assert remedy in done.stderr


def test_dockerfile_reads_the_list():
    text = (ROOT / "Dockerfile").read_text().replace("\\\n", " ")
    (folder,) = re.findall(r"^COPY scripts/packages\* (\S+)/$", text, re.M)
    (install,) = re.findall(r"^RUN (.*apt-get install.*)$", text, re.M)
    assert re.search(rf"cd {folder} && sed '\S+' packages \$\{{WITH:\+\S+packages.\$WITH", install)
    # and no package besides
    assert re.search(r"apt-get install(\s+--\S+)*\s+&&", install)
    ignored = (ROOT / ".dockerignore").read_text().splitlines()
    assert "!scripts/packages*" in ignored


def test_list_provides_every_import():
    for name in third_party("thermowear", "tests"):
        package = PACKAGE_OF.get(name, "python3-" + name.replace("_", "-"))
        assert package in PACKAGES, f"{name} is imported; is it in {package}?"


def test_env_with_further_packages():
    """requirement: a list of scripts/ by its name; others are refused."""
    done = subprocess.run(
        [ROOT / "scripts/env", "true"],
        env=os.environ | {"THERMOWEAR_WITH": "nothing", "THERMOWEAR_ENV": "direct"},
        text=True,
        capture_output=True,
    )
    assert done.returncode == 1
    assert "THERMOWEAR_WITH is nothing; it may be studies or docs" in done.stderr


def test_env_asks_for_every_import_of_the_package():
    text = (ROOT / "scripts/env").read_text()
    asked = set(re.search(r"^modules=\(([^)]*)\)", text, re.M)[1].split())
    with_dolfinx = {name for name, package in PACKAGE_OF.items() if package == "python3-dolfinx"}
    assert third_party("thermowear") - with_dolfinx - {"vtkmodules"} <= asked
