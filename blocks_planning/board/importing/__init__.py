"""Readers of silhouettes from files of other programs.

``documents`` turns a file into plain values, ``blocklists`` and ``grids`` turn values into cells,
``cells`` turns cells into a board and a mask, and ``towers`` combines them for a file.
"""
