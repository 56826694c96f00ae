// Writes no color: the stencil counts.
#version 450

void main() {}
