"""The three Bessel ratios that carry the whole contact law."""
