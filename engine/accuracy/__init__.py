"""Speed against accuracy.

`study` measures errors and costs over a ladder of step sizes; `rounding` is the floor below which none helps;
`recommend` searches for the cheapest step size that reaches a target, and for the most accurate within a budget.
`growth` tells with which power of time the angle's error grows.  Beside the methods, where cost is seconds
(`timing`), is what has no step size: `front` has a ladder of tolerances for the motion by its `taylor` series,
`closed_form` the floor.  `ahead` says who is the cheapest at each accuracy, and `advice` what to take for one.
"""
