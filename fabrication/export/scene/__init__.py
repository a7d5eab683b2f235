"""What the 3D view shows: layers of packed arrays, and the page's part that draws them.

``layers`` are the kinds of things on the screen; ``strips``, ``bodies``, ``panels`` and ``net``
make them of what is designed; ``page`` packs a scene for HTML. ``layers.js`` and ``viewer.js`` draw
it with three.js. Reports, notebooks and the studio share all of it.
"""
