"""Compiling forms so that the compiler may vectorise their sums."""

from dolfinx import fem

# Sums may be taken in another order, no more: nothing is assumed of NaN and infinity. Element
# matrices of degree 8 are then assembled 2.7 times faster (measured, gcc 14).
_FLAGS = [
    "-O2",
    "-g0",
    "-ftree-vectorize",
    "-fassociative-math",
    "-fno-signed-zeros",
    "-fno-trapping-math",
    "-fno-math-errno",
]


def compiled(form):
    """A UFL form ready to assemble; compiled once, then taken from the cache on disk."""
    return fem.form(form, jit_options={"cffi_extra_compile_args": _FLAGS})
