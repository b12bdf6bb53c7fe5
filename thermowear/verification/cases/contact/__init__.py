"""Contact without wear: patch tests, contact methods, Hertz."""
