"""Shared code of all node processes: start and stop, peers, parameters, diagnostics, bring-up."""
