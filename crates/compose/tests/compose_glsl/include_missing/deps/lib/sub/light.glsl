float g() { return 1.0; }
