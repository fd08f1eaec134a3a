"""Compiled searches. Only :mod:`blocks_planning.search` calls them; arguments are not checked."""
