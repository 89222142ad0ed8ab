float top() { return 3.0; }
