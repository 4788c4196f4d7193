"""How two sets of layers differ, as raw bits."""

import numpy


def bits(values):
    """The values as whole numbers of their size, so that -0 is not 0 and a NaN equals itself."""
    return numpy.ascontiguousarray(values).view(f"u{values.dtype.itemsize}")


def pixels_of(layers):
    """The size of the picture in words; of an encoded file the number of its bytes."""
    sizes = sorted({values.shape[:2] for values in layers.values()})
    return ", ".join(f"{shape[1]}×{shape[0]}" if len(shape) > 1 else f"{shape[0]} bytes" for shape in sizes)


def layer_difference(name, old, new):
    """One layer's difference in words, or "" where there is none."""
    if old.dtype != new.dtype or old.shape != new.shape:
        return f"{name}: {old.shape} of {old.dtype} became {new.shape} of {new.dtype}"
    unequal = bits(old) != bits(new)
    count = numpy.count_nonzero(unequal)
    if count == 0:
        return ""
    with numpy.errstate(invalid="ignore", over="ignore"):
        off = numpy.where(unequal, numpy.abs(old.astype(float) - new.astype(float)), 0.0)
    finite = numpy.where(numpy.isfinite(off), off, 0.0)
    place = numpy.unravel_index(numpy.argmax(finite), off.shape)
    odd = count - numpy.count_nonzero(unequal & numpy.isfinite(off))
    where = ", ".join(map(str, (place[1], place[0], *place[2:]) if len(place) > 1 else place))
    return (f"{name}: {count} of {old.size} values, largest {finite[place]:.3g} at ({where}), where it was "
            f"{old[place]:.6g}" + (f", {odd} not finite" if odd else ""))


def difference(old, new):
    """The layers that differ, in words, or "" where all bits are equal."""
    if set(old) != set(new):
        return f"layers {' '.join(sorted(old))} became {' '.join(sorted(new))}"
    found = [layer_difference(name, old[name], new[name]) for name in old]
    return "; ".join(one for one in found if one)
