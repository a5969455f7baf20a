"""Speed against accuracy: errors, costs, the front of the cheapest methods, recommendations."""
