// Writes no color: for passes that only write depth or stencil.
#version 450

void main() {}
