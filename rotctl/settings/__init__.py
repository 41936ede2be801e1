"""Settings: from YAML to plain data to frozen, validated dataclasses, and back."""
