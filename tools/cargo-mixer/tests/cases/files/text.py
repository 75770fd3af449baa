"""The text of a report page, without its pictures: a line per heading, paragraph, item and row."""
import sys
from html.parser import HTMLParser

BLOCKS = {"h1", "h2", "h3", "p", "li", "tr", "figcaption", "summary", "caption", "title"}


class Text(HTMLParser):
    hidden, line = 0, ""

    def end(self):
        if self.line.strip(" |"):
            print(" ".join(self.line.split()))
        self.line = ""

    def handle_starttag(self, tag, attributes):
        self.hidden += tag in {"svg", "script", "style"}
        if tag in BLOCKS:
            self.end()
        elif tag in {"td", "th"}:
            self.line += " | "

    def handle_endtag(self, tag):
        self.hidden -= tag in {"svg", "script", "style"}
        if tag in BLOCKS:
            self.end()

    def handle_data(self, data):
        if not self.hidden:
            self.line += data


with open(sys.argv[1], encoding="utf-8") as page:
    Text().feed(page.read())
