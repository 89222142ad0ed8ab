// package::m

/// Documented.
fn lit(x: f32) -> f32 { return x * factor; }
// About factor.
const factor = 2.0; // really

// package::main

/* A block
   right above */
@must_use
fn main() -> f32 { // trailing
    // first

    let  x   =  lit ( 1.0 );   // odd spacing stays
    let z = 3.0; // stays
    return x /* inner */ + z;
} // end of main

const near1 = 1; // one
const near2 = 2;

const far = 3;
