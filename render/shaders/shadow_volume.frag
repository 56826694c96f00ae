// Nothing: the stencil counts.
#version 450

void main() {}
