"""Links of the written site: files, pictures and anchors that do not exist are listed.

    python3 docs/extensions/check_links.py docs/_build/html

Links to other sites are not followed: they are counted, and `make links` asks them.
"""

from __future__ import annotations

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """Anchors of a page, and its links.

    Attributes
    ----------
    anchors : set of str
    links : list of str
    """

    def __init__(self, text: str):
        super().__init__()
        self.anchors: set[str] = set()
        self.links: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        for name, value in attrs:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            elif name in ("href", "src") and value is not None and tag != "form":
                self.links.append(value)


def broken(site: Path) -> tuple[list[str], int, int]:
    """Broken links as `page: link`, and the numbers of links in the site and to other sites."""
    pages = {
        path: Page(path.read_text(encoding="utf-8"))
        for path in site.rglob("*.html")
        if "_static" not in path.parts
    }
    found, inside, outside = [], 0, 0
    for path, page in pages.items():
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                outside += 1
                continue
            inside += 1
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            lost = target in pages and parts.fragment not in {"", *pages[target].anchors}
            if lost or not target.exists():
                found.append(f"{path.relative_to(site)}: {link}")
    return found, inside, outside


def main(site: Path) -> int:
    found, inside, outside = broken(site.resolve())
    for line in found:
        print(f"broken link in {line}", file=sys.stderr)
    print(f"{inside} links, {len(found)} of them broken; {outside} links to other sites")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
