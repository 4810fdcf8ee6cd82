// Depth only.

void main() {}
