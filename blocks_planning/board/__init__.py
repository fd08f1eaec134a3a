"""What a tower is: cells, blocks, the rules of dropping them, and silhouettes on disk."""
