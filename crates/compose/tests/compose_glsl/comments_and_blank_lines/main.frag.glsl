// Licence.

#version 450

/* Detached. */

// Attached to color,
/* in two parts. */
layout(location = 0) out vec4 color; // written by main
// Attached to f.
float f(float x) { /* inner */ return x; } /* after f */ // and more


// Detached too.


#if DEEP
// Attached under a condition.
float g(float x) {   
    float y = x;	



    // Kept in the middle. 
#if DEEP
    // First in the branch.
    y += 1.0; // trailing

#endif // DEEP

    return y // broken
        + 1.0;
}
#endif
void main() {
    color = vec4(f(1.0), g(2.0), 0.0, 1.0);
    /* last */
}
// At the end.
