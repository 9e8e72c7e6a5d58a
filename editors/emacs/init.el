(load (locate-user-emacs-file "hyde-ts-mode"))
(add-hook 'hyde-ts-mode-hook 'eglot-ensure)
