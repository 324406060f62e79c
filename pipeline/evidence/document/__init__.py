"""Results in words: the marked blocks of README.md and docs/."""
