"""What any numerical method needs: nodes and matrices of interpolation, brackets, loops over arrays."""
