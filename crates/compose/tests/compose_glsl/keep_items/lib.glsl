// Not wanted.
float not_wanted() { return float(OTHER); }

float helper(float x) { return x * float(MAX_LIGHTS); }

/// The wanted one.
float wanted(float x) { return helper(x); }

void main() { not_wanted(); }
