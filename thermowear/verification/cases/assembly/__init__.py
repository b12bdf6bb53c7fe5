"""Models of several bodies: brakes with two pads, packs of clutch disks, seals."""
