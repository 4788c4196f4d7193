"""Tables in Markdown on standard output, and figures in JSON files."""

import json


def markdown_row(texts):
    return "| " + " | ".join(texts) + " |"


def print_head(titles):
    print(markdown_row(titles) + "\n|" + "---|" * len(titles), flush=True)


def print_row(texts):
    print(markdown_row(texts), flush=True)


class Table:
    """Prints its rows as they come, and keeps their figures for a file."""

    def __init__(self, titles):
        self.figures = []
        print_head(titles)

    def add(self, figures, texts):
        self.figures.append(figures)
        print_row(texts)


def write_figures(options, figures):
    """To the file of --json, where it is given."""
    if options.json:
        options.json.write_text(json.dumps(figures, indent=1) + "\n")
