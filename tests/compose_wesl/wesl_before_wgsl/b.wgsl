const y = 3;
