"""Fillets with the least root stress: families of fillets, what they are judged by, their search and its proof."""
