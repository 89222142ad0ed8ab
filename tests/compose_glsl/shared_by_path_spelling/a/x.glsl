#pragma once
void x() {}
