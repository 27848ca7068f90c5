"""What is drawn of a solid: whole, cut open, peeled, pulled apart; for views and for figures."""
