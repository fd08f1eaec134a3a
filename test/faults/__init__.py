"""Nodes that are killed, stopped and doubled while trials run through the graph."""
