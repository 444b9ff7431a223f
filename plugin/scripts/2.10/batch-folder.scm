; Fills every picture of a folder that has a mask. GIMP 2.10.
;
;   gimp-console-2.10 -i -b '(load "batch-folder.scm")' \
;     -b '(recede-batch "/photos" "png" 1 60 0)' -b '(gimp-quit 0)'
;
; For each /photos/NAME.png with a /photos/NAME-mask.png beside it (white: to fill), writes
; /photos/NAME-filled.png. orientation: 0 read from each picture, 1 slant and tilt as given.
(define (recede-select-by-mask image path)
  (let* ((mask (car (gimp-file-load-layer RUN-NONINTERACTIVE image path))))
    (gimp-image-insert-layer image mask 0 0)
    (let* ((channel (car (gimp-channel-new-from-component image CHANNEL-RED "mask"))))
      (gimp-image-remove-layer image mask)
      (gimp-image-insert-channel image channel 0 0)
      (gimp-image-select-item image CHANNEL-OP-REPLACE channel)
      (gimp-image-remove-channel image channel))))

(define (recede-fill-by-mask stem suffix orientation slant tilt)
  (let* ((in (string-append stem suffix))
         (out (string-append stem "-filled" suffix))
         (image (car (gimp-file-load RUN-NONINTERACTIVE in in)))
         (layer (car (gimp-image-get-active-drawable image))))
    (recede-select-by-mask image (string-append stem "-mask" suffix))
    (plug-in-recede-fill RUN-NONINTERACTIVE image layer
                         orientation slant tilt 50 2 -1 0 1 0 0)
    (gimp-selection-none image)
    (gimp-file-save RUN-NONINTERACTIVE image layer out out)
    (gimp-image-delete image)))

(define (recede-batch folder type orientation slant tilt)
  (let* ((ending (string-append "-mask." type))
         (masks (cadr (file-glob (string-append folder "/*" ending) 1))))
    (for-each
      (lambda (mask)
        (recede-fill-by-mask
          (substring mask 0 (- (string-length mask) (string-length ending)))
          (string-append "." type) orientation slant tilt))
      masks)))
