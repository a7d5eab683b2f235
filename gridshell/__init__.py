"""gridshell: from a surface to a net of curves that can be built.

The pipeline, in the paper's words (Jiang, Wang, Schling and Pottmann, AAG 2020)::

    surface  = Enneper(scale=4000.0)                            a surface S, mm
    control  = control_patch(surface, patch)                    the control mesh C on it
    recipe   = a_net(angle=radians(60))                         planar stars (7), node angle (4)
    result   = optimize(control, recipe, anchor=Free())         Levenberg-Marquardt
    net, _   = diagonal_meshes(result.require().control)        D1 and D2
    quality  = result.quality                                   what the net is judged by

A surface from a file comes by ``read_design``; ``quadrangulate`` lays a quad mesh over it along two
families of directions, and its ``control()`` is the control mesh, its ``reference`` the surface.
A quad mesh drawn elsewhere enters through ``read_mesh`` and ``as_control_mesh`` (its diagonals
become the net) or ``control_mesh`` (its edges do). Lengths are mm, angles radians, arrays frozen.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
