"""Files and caches that are killed, flipped, cut, starved and fuzzed."""
