"""The options of the commands, each declared once: `arguments` has them, the command line and the Python interface are made from it."""
