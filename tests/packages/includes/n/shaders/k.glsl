float k() { return 1.0; }
