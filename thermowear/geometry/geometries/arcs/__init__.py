"""Bodies in contact along a circular arc: on a disk, in a ring or in a hole."""
