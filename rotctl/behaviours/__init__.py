"""Classes of motion: what each wants of the character at every instant."""
