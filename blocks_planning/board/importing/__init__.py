"""Readers of silhouettes in forms that other programs write.

``documents`` turns a file into plain values, ``blocklists`` and ``grids`` turn values into cells,
``cells`` turns cells into a board and a mask, and ``towers`` does all of it for a file.
"""
