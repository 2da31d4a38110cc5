"""Where a fracture crosses an interface, stops at it or makes it give way, over stress, friction, strength and modulus, beside published criteria."""
