"""The stages behind the Makefile; README.md shows which makes what from what."""
