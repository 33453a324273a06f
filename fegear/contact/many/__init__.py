"""Load sharing and transmission error of arrays of spur pairs: the numbers of `contact.plane`, in machine code."""
