"""Bags on disk: rosbag2 directories of MCAP files, as ROS 2 Jazzy reads them; no node in here.

::

    bag/metadata.yaml     what is in the files; written when the recording ends, or by a repair
        bag_0.mcap        messages in chunks, each on disk when :meth:`.writer.BagWriter.flush`
        bag_1.mcap        returns; an index at the end
        bag_1.mcap.torn   what a repair put aside: the end of a file that was cut off

A bag is finished when metadata.yaml lists every file and every file has its index. Everything
else was cut off, by a killed process or a power cut, and :mod:`.repair` makes it whole: all that
was flushed is kept, and what follows is put aside, never deleted. Whoever writes in a bag holds
a lock on its directory; the lock ends with the process.
"""

from __future__ import annotations

from blocks_planning.errors import InvalidInput


class BagError(InvalidInput):
    """A bag that can't be read, written or repaired."""
