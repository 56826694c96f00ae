// Writes no color: only the stencil operations matter.
#version 450

void main() {}
