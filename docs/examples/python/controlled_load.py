"""A load that depends on the answer: a layer is pressed until it has settled by 5 mm, whatever its stiffness.

The program reads the settlement after each increment and chooses the pressure at the end of the stage anew, so that
the settlement would just be reached.  The layer is 2 m thick with nu = 0, so the answer is p = s E / H.
"""
import sagefe

TARGET = 5e-3  # m


def layer(modulus):
    nodes = [(x, 0.5 * row) for row in range(5) for x in (0.0, 1.0)]
    quads = [(2 * row + 1, 2 * row + 2, 2 * row + 4, 2 * row + 3) for row in range(4)]
    return sagefe.build(
        nodes,
        [sagefe.Material("linear_elastic", youngs_modulus=modulus, poissons_ratio=0.0)],
        [sagefe.Group("quad4", quads)],
        [sagefe.Stage(8, "press", pressures=[sagefe.Pressure([4], 3, 10.0)])],
        supports=[sagefe.Support([1, 2], "fixed", "fixed"), sagefe.Support(range(3, 11), "fixed")],
        units=("m", "kN", "kPa"),
    )


for modulus in (5e3, 20e3, 80e3):
    pressure = 10.0
    with layer(modulus).analysis() as analysis:
        while analysis.advance():
            state = analysis.state()
            settlement = -state.nodes.displacement[-1, 1]
            carried = state.points.stress[-1, 1]
            if not analysis.is_complete:
                pressure = carried * TARGET / settlement
                analysis.set_pressure(pressure)
    print(f"{modulus:.0f} kPa: {1e3 * settlement:.7f} mm under {carried:.7f} kPa")
