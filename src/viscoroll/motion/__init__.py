"""Motion of the cylinder, Eq. (22): one (:mod:`.single`), many (:mod:`.batch`)."""
