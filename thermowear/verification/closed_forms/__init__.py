"""Special cases against closed forms: steady principle on rigid faces, without finite elements.

Each case is solved by the generic method on points of its geometry (`patches`); closed forms are
references only. Tabulated numbers must agree to the last digit.
"""
