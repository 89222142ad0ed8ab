#pragma once
void a() {}
