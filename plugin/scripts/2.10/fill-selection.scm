; Fills a rectangle of a picture and saves the result. GIMP 2.10.
;
;   gimp-console-2.10 -i -b '(load "fill-selection.scm")' \
;     -b '(recede-fill-rectangle "street.png" "filled.png" 420 420 160 80)' -b '(gimp-quit 0)'
;
; The orientation of the ground is read from the picture. To give it, put 1 (angles) for the first
; number and the slant and tilt after it. Every argument must be there, in this order:
;   orientation  0 auto, 1 angles, 2 frontal
;   slant tilt fov                            degrees
;   surface      0 flat, 1 raised, 2 auto
;   source       a channel or layer whose light parts may be copied from, or -1
;   method       0 plane, 1 paper, 2 kwatra
;   quality      0 draft, 1 normal, 2 best
;   seed         another seed gives another fill
;   result       0 in place, 1 a new layer
(define (recede-fill-rectangle in out x y width height)
  (let* ((image (car (gimp-file-load RUN-NONINTERACTIVE in in)))
         (layer (car (gimp-image-get-active-drawable image))))
    (gimp-image-select-rectangle image CHANNEL-OP-REPLACE x y width height)
    (plug-in-recede-fill RUN-NONINTERACTIVE image layer 0 45 0 50 2 -1 0 1 0 0)
    (gimp-selection-none image)
    (gimp-file-save RUN-NONINTERACTIVE image layer out out)
    (gimp-image-delete image)))
