float b() { return 1.0; }
