;;; hyde-ts-mode.el --- Models of feed drives in Hyde -*- lexical-binding: t -*-

;; Version: 0.1.0
;; Package-Requires: ((emacs "29.1"))
;; Keywords: languages
;; SPDX-License-Identifier: MIT OR Apache-2.0

;;; Commentary:

;; Colours, indentation, folds and a menu of a file by the parser `tree-sitter-hyde', and the server `hyde lsp' by Eglot.
;; Emacs looks for the parser `libtree-sitter-hyde.so' in the folder `tree-sitter' of `user-emacs-directory'.

;;; Code:

(require 'treesit)
(require 'prog-mode)

(defgroup hyde nil
  "Models of feed drives in Hyde."
  :group 'languages)

(defcustom hyde-ts-mode-indent-offset 2
  "Columns that the content of a block is indented by; `hyde fmt' has 2."
  :type 'integer
  :safe #'integerp)

(defvar hyde-ts-mode--syntax-table
  (let ((table (make-syntax-table)))
    (modify-syntax-entry ?_ "_" table)
    (modify-syntax-entry ?\\ "\\" table)
    (modify-syntax-entry ?/ ". 124b" table)
    (modify-syntax-entry ?* ". 23" table)
    (modify-syntax-entry ?\n "> b" table)
    (dolist (sign '(?+ ?- ?= ?< ?> ?~ ?^ ?%))
      (modify-syntax-entry sign "." table))
    table)
  "Syntax of comments, texts and signs.")

(defvar hyde-ts-mode--words
  '("add" "assert" "at" "bode" "budget" "by" "calibrate" "clocked" "confounds" "connect" "connector" "discretize" "dissipated"
    "domain" "effect" "else" "elseif" "elsewhen" "end" "enter" "equation" "every" "exit" "expect" "experiment" "extends" "figure"
    "fmu" "for" "from" "function" "if" "impact" "import" "in" "indomain" "initial" "layout" "leave" "load" "loop" "margins"
    "measure" "measured" "mode" "model" "modes" "of" "on" "over" "package" "per" "record" "reinit" "replace" "replay" "signature"
    "skip" "solve" "start" "stimulus" "stop" "stored" "supplied" "then" "to" "type" "vary" "when" "with" "wrap" "wraps" "each"
    "final" "redeclare" "and" "or" "not")
  "Words of the language that are nodes of their own.")

(defvar hyde-ts-mode--font-lock
  (treesit-font-lock-rules
   :language 'hyde
   :feature 'comment
   '((comment) @font-lock-comment-face)

   :language 'hyde
   :feature 'string
   '((string) @font-lock-string-face
     (quoted_member) @font-lock-string-face
     (doc) @font-lock-doc-face)

   :language 'hyde
   :feature 'keyword
   `([,@hyde-ts-mode--words] @font-lock-keyword-face
     (prefix) @font-lock-keyword-face
     (study_kind) @font-lock-keyword-face)

   :language 'hyde
   :feature 'definition
   '((type_item name: (identifier) @font-lock-type-face)
     (fmu_item name: (identifier) @font-lock-type-face)
     (short_item name: (identifier) @font-lock-type-face)
     (model name: (identifier) @font-lock-type-face)
     (connector name: (identifier) @font-lock-type-face)
     (effect name: (identifier) @font-lock-type-face)
     (function name: (identifier) @font-lock-function-name-face)
     (experiment name: (identifier) @font-lock-type-face)
     (study name: (identifier) @font-lock-type-face)
     (end_clause name: (identifier) @font-lock-type-face)
     (declarator name: (identifier) @font-lock-variable-name-face)
     (measure name: (identifier) @font-lock-variable-name-face)
     (account name: (identifier) @font-lock-variable-name-face)
     (mode_parameter name: (identifier) @font-lock-variable-name-face)
     (record name: (identifier) @font-lock-variable-name-face)
     (figure name: (identifier) @font-lock-variable-name-face)
     (clocked name: (identifier) @font-lock-variable-name-face)
     (domain name: (identifier) @font-lock-variable-name-face))

   :language 'hyde
   :feature 'type
   '((path (identifier) @font-lock-type-face)
     (package_name (identifier) @font-lock-constant-face))

   :language 'hyde
   :feature 'number
   '((number) @font-lock-number-face)

   :language 'hyde
   :feature 'constant
   '((boolean) @font-lock-constant-face
     (mode name: (identifier) @font-lock-constant-face)
     (modes initial: (identifier) @font-lock-constant-face)
     (exit target: (identifier) @font-lock-constant-face)
     (in_mode mode: (identifier) @font-lock-constant-face))

   :language 'hyde
   :feature 'unit
   '((unit_text) @font-lock-builtin-face)

   :language 'hyde
   :feature 'property
   '((member) @font-lock-property-use-face
     (argument name: (identifier) @font-lock-property-name-face)
     (change name: (reference (identifier) @font-lock-property-name-face))
     (setting name: (identifier) @font-lock-property-name-face))

   :language 'hyde
   :feature 'function
   '((call function: (reference :anchor (identifier) @font-lock-function-call-face :anchor))
     (solve method: (identifier) @font-lock-function-call-face))

   :language 'hyde
   :feature 'operator
   '(["+" "-" "*" "/" "^" "<" "<=" ">" ">=" "<>" "==" "=" "~" "±" "%" "->" ".."] @font-lock-operator-face))
  "Colours.")

(defvar hyde-ts-mode--block
  (rx bos (or "model" "connector" "effect" "function" "experiment" "study" "equation_section" "clocked" "modes" "mode" "actions"
              "if_equation" "when_equation" "for_equation" "equations" "source_file")
      eos)
  "Nodes that contain statements.")

(defun hyde-ts-mode--statement (_node parent _bol)
  "The first line of the statement that PARENT is in."
  (let ((statement (treesit-parent-until
                    parent
                    (lambda (node)
                      (let ((outer (treesit-node-parent node)))
                        (or (null outer) (string-match-p hyde-ts-mode--block (treesit-node-type outer)))))
                    t)))
    (save-excursion
      (goto-char (treesit-node-start statement))
      (back-to-indentation)
      (point))))

(defvar hyde-ts-mode--indent
  `((hyde
     ((parent-is "source_file") column-0 0)
     ((node-is "end_clause\\|\\`end\\'\\|equation_section") parent-bol 0)
     ((and (node-is "\\`else") (parent-is "_equation\\'")) parent-bol 0)
     ((node-is "[])}]") parent-bol 0)
     ((parent-is "\\`comment\\'\\|\\`string\\'\\|\\`doc\\'") no-indent 0)
     ((parent-is "\\`equations\\'") parent-bol 0)
     ((parent-is ,hyde-ts-mode--block) parent-bol hyde-ts-mode-indent-offset)
     ((parent-is "\\`in_modes\\'") parent-bol hyde-ts-mode-indent-offset)
     ((n-p-gp nil "\\`modification\\'" "\\`ideal\\'") parent-bol hyde-ts-mode-indent-offset)
     (catch-all hyde-ts-mode--statement hyde-ts-mode-indent-offset)))
  "Indentation, as `hyde fmt' has it.")

(defun hyde-ts-mode--name (node)
  "The name that NODE declares."
  (treesit-node-text (treesit-node-child-by-field-name node "name") t))

(defun hyde-ts-mode--named (node)
  "Whether NODE is no word: the word `model' is a node as well."
  (treesit-node-check node 'named))

;;;###autoload
(define-derived-mode hyde-ts-mode prog-mode "Hyde"
  "Major mode for models of feed drives in Hyde."
  :syntax-table hyde-ts-mode--syntax-table
  (setq-local comment-start "// ")
  (setq-local comment-end "")
  (setq-local indent-tabs-mode nil)
  (when (treesit-ready-p 'hyde)
    (treesit-parser-create 'hyde)
    (setq-local treesit-font-lock-settings hyde-ts-mode--font-lock)
    (setq-local treesit-font-lock-feature-list
                '((comment string)
                  (keyword definition)
                  (type number constant unit)
                  (property function operator)))
    (setq-local treesit-simple-indent-rules hyde-ts-mode--indent)
    (setq-local treesit-defun-type-regexp
                (cons (rx bos (or "model" "connector" "effect" "function" "experiment" "study") eos)
                      #'hyde-ts-mode--named))
    (setq-local treesit-defun-name-function #'hyde-ts-mode--name)
    (setq-local treesit-simple-imenu-settings
                `(("Class" ,(rx bos (or "model" "connector" "effect" "function" "short_item" "fmu_item" "type_item") eos)
                   hyde-ts-mode--named hyde-ts-mode--name)
                  ("Experiment" "\\`experiment\\'" hyde-ts-mode--named hyde-ts-mode--name)
                  ("Study" "\\`study\\'" hyde-ts-mode--named hyde-ts-mode--name)))
    (treesit-major-mode-setup)))

;;;###autoload
(add-to-list 'auto-mode-alist '("\\.hyde\\'" . hyde-ts-mode))

(with-eval-after-load 'eglot
  (defvar eglot-server-programs)
  (add-to-list 'eglot-server-programs '(hyde-ts-mode "hyde" "lsp")))

(provide 'hyde-ts-mode)
;;; hyde-ts-mode.el ends here
