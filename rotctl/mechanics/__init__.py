"""Character, ground, contacts, momentum and excursion; knows MuJoCo, no QP."""
