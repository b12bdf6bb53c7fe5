"""Display on which VTK draws: an X server of our own for builds of VTK that draw through X."""

from __future__ import annotations

import os
import secrets
import shutil
import struct
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from tempfile import TemporaryFile

_BY_X = "vtkXOpenGLRenderWindow"
_SCREEN = "1280x1024x24"


def ending_with_parent() -> list[str]:
    """Prefix of a command that ends when the process ends that started it, however it does."""
    setpriv = shutil.which("setpriv")
    return [setpriv, "--pdeathsig", "TERM"] if setpriv else []


@contextmanager
def display() -> Iterator[None]:
    """Let VTK draw without a screen.

    Newer builds of VTK find EGL or OSMesa; a build for X gets a server of its own, if there is one,
    rather than the user's, which may be far away or gone.

    Raises
    ------
    OSError
        If this build of VTK needs an X server and there is none.
    """
    if not _needs_x():
        yield
    elif shutil.which("Xvfb"):
        with _server():
            yield
    elif os.environ.get("DISPLAY"):
        yield
    else:
        raise OSError("VTK draws through X here, and there is neither Xvfb nor a DISPLAY")


def _needs_x() -> bool:
    """Test whether VTK opens windows of X: the class of a window tells, which is not opened."""
    import_module("vtkmodules.vtkRenderingOpenGL2")  # the classes to choose from
    from vtkmodules.vtkRenderingCore import vtkRenderWindow

    return bool(vtkRenderWindow().GetClassName() == _BY_X)


@contextmanager
def _server() -> Iterator[None]:
    """X server without a screen, as the display of this process.

    It chooses its number itself, and only this process knows the password, in a file without a
    name: nothing is left behind. `xvfb-run` guesses the number, and its server outlives a kill.
    """
    reading, writing = os.pipe()
    with TemporaryFile() as password, open(reading, encoding="ascii") as number:
        password.write(_authority(secrets.token_bytes(16)))
        password.flush()
        path = f"/dev/fd/{password.fileno()}"
        command = [*ending_with_parent(), "Xvfb", "-displayfd", str(writing), "-auth", path]
        command += ["-screen", "0", _SCREEN, "-nolisten", "tcp", "-noreset"]
        server = subprocess.Popen(
            command,
            pass_fds=(writing, password.fileno()),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(writing)  # the end of the server is the end of the file, too
        try:
            found = number.readline().strip()
            if not found:
                raise OSError(f"Xvfb, through which VTK draws, ended with code {server.wait()}")
            os.environ |= {"DISPLAY": f":{found}", "XAUTHORITY": path}
            yield
        finally:
            server.terminate()
            server.wait()


def _authority(cookie: bytes) -> bytes:
    """Entry of an authority file of X for any address and display."""
    texts = (b"", b"", b"MIT-MAGIC-COOKIE-1", cookie)
    parts = (struct.pack(">H", len(text)) + text for text in texts)
    return struct.pack(">H", 0xFFFF) + b"".join(parts)
