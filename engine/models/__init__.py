"""What is simulated, and what it is compared with.

`state` holds the types a method meets, `pendulum` the forces and energies.  `exact_pendulum` is the closed-form
motion, the reference of every error in theta; `modified_energy` is what symplectic methods conserve instead.
"""
