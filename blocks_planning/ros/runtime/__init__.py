"""What every node process needs: start and stop, peers, parameters, diagnostics, bring-up."""
