"""Between the messages of the graph and those of :mod:`blocks_planning.trials`.

``x_to_ros`` and ``x_from_ros`` are inverse to each other, except for headers and explanatory
sentences. An invalid message is refused with a :class:`.fields.MessageError` that names the field,
its value and what is expected; an accepted message cannot break a part.
"""
