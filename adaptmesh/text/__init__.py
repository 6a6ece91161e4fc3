"""How reports and messages are written."""
