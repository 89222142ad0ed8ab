#if FOO
void main() {}
