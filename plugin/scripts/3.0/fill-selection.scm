; Fills a rectangle of a picture and saves the result as PNG. GIMP 3.
;
;   gimp-console-3 -i --quit --batch-interpreter=plug-in-script-fu-eval \
;     -b '(load "fill-selection.scm")' \
;     -b '(recede-fill-rectangle "street.png" "filled.png" 420 420 160 80)'
;
; The orientation of the ground is read from the picture. To give it, add
;   #:orientation "angles" #:slant 60 #:tilt 0
; Every argument but image and drawables may be left out: orientation slant tilt fov surface source
; method quality seed result. Help > Procedure Browser tells their values.
(define (recede-fill-rectangle in out x y width height)
  (let* ((image (car (gimp-file-load RUN-NONINTERACTIVE in)))
         (layers (car (gimp-image-get-selected-drawables image))))
    (gimp-image-select-rectangle image CHANNEL-OP-REPLACE x y width height)
    (plug-in-recede-fill #:run-mode RUN-NONINTERACTIVE #:image image #:drawables layers)
    (gimp-selection-none image)
    ; gimp-file-save would leave the colour profile out.
    (file-png-export #:run-mode RUN-NONINTERACTIVE #:image image #:file out
                     #:include-color-profile TRUE)
    (gimp-image-delete image)))
