#include "plane/fft.h"

#include <math.h>

#define N RC_FFT_SIDE

void rc_fft_init(rc_fft *fft) {
  for (int i = 0; i < N / 2; i++) {
    double angle = -2 * 3.14159265358979323846 * i / N;
    fft->cosine[i] = (float)cos(angle);
    fft->sine[i] = (float)sin(angle);
  }
  for (int i = 0; i < N; i++) {
    int reversed = 0;
    for (int bit = 1; bit < N; bit *= 2) reversed = reversed * 2 + ((i & bit) != 0);
    fft->reversed[i] = (unsigned char)reversed;
  }
}

static void swap_rows(float *a, float *b) {
  for (int x = 0; x < N; x++) {
    float held = a[x];
    a[x] = b[x];
    b[x] = held;
  }
}

/* a, b <- a + t b, a - t b for whole rows: contiguous, so that the compiler uses vectors. */
static void butterfly(rc_fft_square *s, int a, int b, float cosine, float sine) {
  float *ar = s->re[a], *ai = s->im[a], *br = s->re[b], *bi = s->im[b];
  for (int x = 0; x < N; x++) {
    float tr = br[x] * cosine - bi[x] * sine, ti = br[x] * sine + bi[x] * cosine;
    br[x] = ar[x] - tr;
    bi[x] = ai[x] - ti;
    ar[x] += tr;
    ai[x] += ti;
  }
}

static void transform_columns(const rc_fft *fft, rc_fft_square *s) {
  for (int i = 0; i < N; i++)
    if (fft->reversed[i] > i) {
      swap_rows(s->re[i], s->re[fft->reversed[i]]);
      swap_rows(s->im[i], s->im[fft->reversed[i]]);
    }
  for (int half = 1; half < N; half *= 2)
    for (int start = 0; start < N; start += 2 * half)
      for (int k = 0; k < half; k++) {
        int turn = k * (N / 2 / half);
        butterfly(s, start + k, start + k + half, fft->cosine[turn], fft->sine[turn]);
      }
}

static void transpose(float square[N][N]) {
  for (int y = 0; y < N; y++)
    for (int x = y + 1; x < N; x++) {
      float held = square[y][x];
      square[y][x] = square[x][y];
      square[x][y] = held;
    }
}

void rc_fft_forward(const rc_fft *fft, rc_fft_square *square) {
  transform_columns(fft, square);
  transpose(square->re);
  transpose(square->im);
  transform_columns(fft, square);
}
