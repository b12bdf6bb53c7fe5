"""Interface problem: contact with wear and heat at one time, and its fixed-point iteration."""
