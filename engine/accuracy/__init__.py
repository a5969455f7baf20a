"""Speed against accuracy.

`study` measures each method's errors and costs over a ladder of step sizes; `rounding` estimates
the errors that rounding leaves however small the step.  `front` finds the cheapest method at each
accuracy.  `recommend` searches for each method's cheapest step size that reaches a target, and for
the most accurate one within a budget.  `growth` fits the power of time with which the error in
theta grows.

`references` measures two solutions that have no step size, and can be compared in seconds only:
the `taylor` series of the motion, at a ladder of tolerances, and the closed form.
"""
