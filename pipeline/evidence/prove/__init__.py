"""Law and motions against enclosures, extended precision, and what others computed."""
