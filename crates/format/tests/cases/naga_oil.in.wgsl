#define_import_path lit
#import bevy_pbr::{
    mesh_view_bindings::view,
      forward_io::VertexOutput,
}
#ifdef SHADOWS
fn f( )->f32{ return #{FACTOR} * 2.0 ; }
#else
fn f()->f32 {
    #ifdef A
    return 1.0 ;
    #endif
}
#endif
