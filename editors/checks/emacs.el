;;; emacs.el --- Examples in hyde-ts-mode -*- lexical-binding: t -*-

;;; Commentary:

;; Colours, the menu, the indentation of every example and of the library, and a diagnostic of the server.  `editors/try' runs it.

;;; Code:

(setq inhibit-message t
      treesit-font-lock-level 4
      byte-compile-error-on-warn t)
(byte-compile-file (locate-user-emacs-file "hyde-ts-mode.el"))
(load (locate-user-emacs-file "init.el"))

(defun check (holds &rest message)
  "Ends with MESSAGE unless HOLDS."
  (unless holds
    (princ (format "Emacs %s: %s\n" emacs-version (apply #'format message)))
    (kill-emacs 1)))

(defvar check-same 0)
(dolist (file (directory-files-recursively "/opt/hyde/examples" "\\.hyde\\'"))
  (with-temp-buffer
    (insert-file-contents file)
    (hyde-ts-mode)
    (let ((before (buffer-string)))
      (indent-region (point-min) (point-max))
      (check (string= before (buffer-string)) "%s is indented otherwise:\n%s" file (buffer-string)))
    (setq check-same (1+ check-same))))
(check (> check-same 20) "%d files" check-same)

(with-temp-buffer
  (insert-file-contents "/opt/hyde/examples/first/first.hyde")
  (hyde-ts-mode)
  (font-lock-ensure)
  (dolist (pair '(("model" . font-lock-keyword-face) ("kg\\.m2" . font-lock-builtin-face) ("Inertia" . font-lock-type-face)
                  ("a table on" . font-lock-doc-face)))
    (goto-char (point-min))
    (re-search-forward (car pair))
    (let ((face (get-text-property (match-beginning 0) 'face)))
      (check (eq face (cdr pair)) "`%s' has %s" (car pair) face)))
  (let ((menu (format "%S" (mapcar (lambda (group) (mapcar #'car-safe (cdr group)))
                                   (funcall imenu-create-index-function)))))
    (check (string= menu "((\"Axis\") (\"push\"))") "menu %s" menu)))

(require 'eglot)
(setq eglot-sync-connect 20)
(write-region "package bad;\nimport SI.*;\nmodel Bad\n  Length s = 1 [kg];\nend Bad;\n" nil "/tmp/bad.hyde")
(find-file "/tmp/bad.hyde")
(check (eq major-mode 'hyde-ts-mode) "%s" major-mode)
(unless (eglot-managed-p) (call-interactively #'eglot))
(flymake-mode 1)
(let ((left 200))
  (while (and (> left 0) (null (flymake-diagnostics)))
    (setq left (1- left))
    (accept-process-output nil 0.1)
    (flymake-start)))
(let ((texts (mapconcat #'flymake-diagnostic-text (flymake-diagnostics) "\n")))
  (check (string-match-p "E0301" texts) "diagnostics: %s" texts))
(princ (format "Emacs %s: works\n" emacs-version))
;;; emacs.el ends here
