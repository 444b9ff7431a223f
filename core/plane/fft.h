/* The discrete Fourier transform of small squares. */
#ifndef RECEDE_PLANE_FFT_H
#define RECEDE_PLANE_FFT_H

#define RC_FFT_SIDE 64

typedef struct rc_fft {
  float cosine[RC_FFT_SIDE / 2], sine[RC_FFT_SIDE / 2];
  unsigned char reversed[RC_FFT_SIDE];
} rc_fft;

/* RC_FFT_SIDE^2 numbers, rows contiguous; F(k) = sum f(x) exp(-2 pi i k x / side). */
typedef struct rc_fft_square {
  float re[RC_FFT_SIDE][RC_FFT_SIDE], im[RC_FFT_SIDE][RC_FFT_SIDE];
} rc_fft_square;

void rc_fft_init(rc_fft *fft);
/* In place. The result is transposed: [kx][ky]. */
void rc_fft_forward(const rc_fft *fft, rc_fft_square *square);

#endif
