float a; /* no end
