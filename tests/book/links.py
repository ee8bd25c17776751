#!/usr/bin/env python3
"""Follows every link within a book as mdbook rendered it: python3 tests/book/links.py FOLDER

Fails when a page, a picture, a script or a place in a page is named that is not there, or when text of mdbook was left as it was.
Links to other sites are not followed.
"""

import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Page(HTMLParser):
    """What a page links to, and the places in it that can be linked to."""

    def __init__(self, path):
        super().__init__()
        self.links, self.places, self.text = [], {"", "top"}, []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        found = dict(attributes)
        self.places.update(found[key] for key in ("id", "name") if found.get(key))
        self.links += [found[key] for key in ("href", "src") if found.get(key)]

    def handle_data(self, data):
        self.text.append(data)


def wrong(folder):
    pages = {path.resolve(): Page(path) for path in sorted(folder.rglob("*.html"))}
    for path, page in pages.items():
        name = path.relative_to(folder)
        if name.name == "404.html":
            continue  # its base is wherever the book is served from
        if any("{{#" in text for text in page.text):
            yield f"{name}: a `{{{{#...}}}}` of mdbook is not filled in"
        for link in page.links:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            target = target / "index.html" if target.is_dir() else target
            if not target.exists():
                yield f"{name}: {link} is not there"
            elif target in pages and unquote(parts.fragment) not in pages[target].places:
                yield f"{name}: {link} names no place in {target.relative_to(folder)}"


def main(folder):
    folder = Path(folder).resolve()
    found = sorted(set(wrong(folder)))
    if not (folder / "index.html").exists():
        found.append(f"{folder} holds no book")
    if found:
        raise SystemExit("\n".join(found))
    print(f"every link within {folder} leads somewhere")


if __name__ == "__main__":
    main(sys.argv[1])
