// Squares of pixels in a list: the corner in units of the square's edge, sixteen bits each.
#ifndef LUMULUS_LIB_SQUARE
#define LUMULUS_LIB_SQUARE

uint packedSquare(ivec2 square) { return uint(square.y) << 16u | uint(square.x); }

ivec2 squareAt(uint packed) { return ivec2(packed & 0xffffu, packed >> 16u); }

#endif
