#import other::thing
virtual fn shade() -> f32 { return thing(); }
