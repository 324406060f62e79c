"""Files: tables of the law, run files and their stores."""
