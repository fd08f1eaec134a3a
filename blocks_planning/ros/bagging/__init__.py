"""Bags on disk: rosbag2 directories of MCAP files, as ROS 2 Jazzy reads them.

::

    bag/metadata.yaml     content of the files; written when the recording ends, or by a repair
        bag_0.mcap        messages in chunks, each on disk when :meth:`.writer.BagWriter.flush`
        bag_1.mcap        returns; an index at the end
        bag_1.mcap.torn   the end of a truncated file, moved here by a repair

A bag is finished when metadata.yaml lists every file and every file has its index. Any other bag
was truncated, by a killed process or a power cut, and :mod:`.repair` repairs it: all flushed
messages are kept, and the rest is moved to another file, never deleted. A process that writes to a
bag holds a lock on its directory; the lock ends with the process.
"""

from __future__ import annotations

from blocks_planning.errors import InvalidInput


class BagError(InvalidInput):
    """A bag that can't be read, written or repaired."""
