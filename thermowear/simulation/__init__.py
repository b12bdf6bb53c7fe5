"""Simulation: initial contact, steady state, transient, fretting, reciprocating, stability."""

from .from_case import run
from .runtime.observer import Observer
