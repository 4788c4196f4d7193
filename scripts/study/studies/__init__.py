"""One module, or one package, for each study. A study has a docstring whose first sentence `run --help` shows,
`add_options(parser)`, and `main(options)`, which returns the exit code (None is 0)."""
