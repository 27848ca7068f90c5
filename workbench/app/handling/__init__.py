"""What a hand does to anchors: pull, turn, choose by box and by patch."""
