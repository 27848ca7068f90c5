"""What views draw beside colours: edges, wires, seams, the boundary, a scale bar."""
