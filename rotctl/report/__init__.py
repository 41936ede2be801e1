"""Pictures and pages out of logs; never simulates."""
