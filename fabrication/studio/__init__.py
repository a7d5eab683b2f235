"""The studio: a project in the browser, to look at and to change.

``versions`` are projects as documents that a slider can change, with their undo; ``disk`` reads and
writes the project's file and notices when another program does; ``design`` goes from a project to
its net and to what is built of it; ``session`` holds all that for one project, whoever looks;
``scenes`` show it. ``guard``, ``page`` and ``serve`` put it on a page, on this machine only.
"""
