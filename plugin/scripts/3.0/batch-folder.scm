; Fills every picture of a folder that has a mask. GIMP 3.
;
;   gimp-console-3 -i --quit --batch-interpreter=plug-in-script-fu-eval \
;     -b '(load "batch-folder.scm")' -b '(recede-batch "/photos" "png" "angles" 60 0)'
;
; For each /photos/NAME.png with a /photos/NAME-mask.png beside it (white: to fill), writes
; /photos/NAME-filled.png. orientation: "auto" reads it from each picture, "angles" takes slant and
; tilt as given.
(define (recede-select-by-mask image path)
  (let* ((mask (car (gimp-file-load-layer RUN-NONINTERACTIVE image path))))
    (gimp-image-insert-layer image mask 0 0)
    (let* ((channel (car (gimp-channel-new-from-component image CHANNEL-RED "mask"))))
      (gimp-image-remove-layer image mask)
      (gimp-image-insert-channel image channel 0 0)
      (gimp-image-select-item image CHANNEL-OP-REPLACE channel)
      (gimp-image-remove-channel image channel))))

; gimp-file-save would leave the colour profile out.
(define (recede-save image path suffix)
  (let* ((export (cond ((string=? suffix ".png") file-png-export)
                       ((string=? suffix ".jpg") file-jpeg-export)
                       ((string=? suffix ".tif") file-tiff-export)
                       (else #f))))
    (if export
      (export #:run-mode RUN-NONINTERACTIVE #:image image #:file path #:include-color-profile TRUE)
      (gimp-file-save RUN-NONINTERACTIVE image path -1))))

(define (recede-fill-by-mask stem suffix orientation slant tilt)
  (let* ((image (car (gimp-file-load RUN-NONINTERACTIVE (string-append stem suffix))))
         (layers (car (gimp-image-get-selected-drawables image))))
    (recede-select-by-mask image (string-append stem "-mask" suffix))
    (plug-in-recede-fill #:run-mode RUN-NONINTERACTIVE #:image image #:drawables layers
                         #:orientation orientation #:slant slant #:tilt tilt)
    (gimp-selection-none image)
    (recede-save image (string-append stem "-filled" suffix) suffix)
    (gimp-image-delete image)))

(define (recede-batch folder type orientation slant tilt)
  (let* ((ending (string-append "-mask." type))
         (masks (car (file-glob #:pattern (string-append folder "/*" ending)
                                #:filename-encoding TRUE))))
    (for-each
      (lambda (mask)
        (recede-fill-by-mask
          (substring mask 0 (- (string-length mask) (string-length ending)))
          (string-append "." type) orientation slant tilt))
      masks)))
