"""Balls: on a block, in a socket."""
