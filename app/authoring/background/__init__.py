"""Slow answers, computed in threads and cached: what renders contain, which shader files there are."""
