#version 450
#define CHECK(n) const int ok_##n = n;
#if 1 + 2 * 3 == 7 && (1 + 2) * 3 == 9
CHECK(1)
#endif
#if 7 / 2 == 3 && -7 / 2 == -3 && 7 % 3 == 1 && -7 % 3 == -1
CHECK(2)
#endif
#if 1 << 4 == 16 && -16 >> 2 == -4 && (0xF0 & 0x3C) == 0x30 && (1 | 6) == 7 && (5 ^ 1) == 4 && ~0 == -1
CHECK(3)
#endif
#if !0 && !!5 && +3 == 3 && - -3 == 3
CHECK(4)
#endif
#if 010 == 8 && 0x10u == 16 && 0XfF == 255
CHECK(5)
#endif
#if 2147483647 + 1 == -2147483647 - 1 && 0xFFFFFFFF == -1
CHECK(6)
#endif
#if 1 < 2 && 2 > 1 && 2 <= 2 && 2 >= 2 && 1 != 2 && (1 == 1) == 1
CHECK(7)
#endif
#if 1 || 1 / 0
CHECK(8)
#endif
#if 0 && (UNDEFINED + 1 / 0)
#else
CHECK(9)
#endif
#if 4 & 2 == 2
#else
CHECK(10)
#endif
#if 10 - 4 - 3 == 3 && 100 / 10 / 5 == 2
CHECK(11)
#endif
#if \
  1 /* a comment
  over lines */ + 1 == 2 // done
CHECK(12)
#endif
void main() {
    int sum = ok_1 + ok_2 + ok_3 + ok_4 + ok_5 + ok_6 + ok_7 + ok_8 + ok_9 + ok_10 + ok_11 + ok_12;
}
