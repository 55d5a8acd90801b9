"""The same questions put to others, where they are installed. Answers are compared before times."""
