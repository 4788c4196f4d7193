"""The measurements of lumulus: `scripts/study/run --help` lists them, scripts/study/README.md says what each answers."""
