float a() { return 1.0; }
float b() { return 1.0; }
