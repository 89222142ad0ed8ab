// Included by every shader; `metal_stdlib` has all that is needed of it.
#pragma once
