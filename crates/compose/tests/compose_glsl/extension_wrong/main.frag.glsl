#version 450
#extension
#extension GL_EXT_x
#extension GL_EXT_x : maybe
#extention GL_EXT_x : enable
#if 0
#nothing
#endif
#
# /* nothing either */
void main() {}
#extension all : require
#extension all : warn
