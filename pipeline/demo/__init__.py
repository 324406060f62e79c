"""What ``make demo`` builds: tables, validation, motions, an ensemble, figures and a page over them."""
