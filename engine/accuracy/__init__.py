"""Speed against accuracy: errors, costs, the cheapest methods, recommendations."""
