; The installer for Windows. dist/windows/package calls makensis with VERSION, BINARY, ICON and OUTPUT.
; It installs for the user who starts it, so it asks for no administrator. It is not signed: Windows says so once.
Unicode true
Name "Rilievo"
OutFile "${OUTPUT}"
RequestExecutionLevel user
InstallDir "$LOCALAPPDATA\Programs\Rilievo"
InstallDirRegKey HKCU "Software\Rilievo" "Folder"
SetCompressor /SOLID lzma
Icon "${ICON}"
UninstallIcon "${ICON}"
VIProductVersion "${VERSION}.0"
VIAddVersionKey "ProductName" "Rilievo"
VIAddVersionKey "FileDescription" "Installs Rilievo, a painting program"
VIAddVersionKey "FileVersion" "${VERSION}"
VIAddVersionKey "LegalCopyright" "MIT or Apache-2.0"

!include "MUI2.nsh"
!define MUI_ICON "${ICON}"
!define MUI_UNICON "${ICON}"
!define MUI_FINISHPAGE_RUN "$INSTDIR\rilievo-launcher.exe"
!insertmacro MUI_PAGE_DIRECTORY
!insertmacro MUI_PAGE_INSTFILES
!insertmacro MUI_PAGE_FINISH
!insertmacro MUI_UNPAGE_CONFIRM
!insertmacro MUI_UNPAGE_INSTFILES
!insertmacro MUI_LANGUAGE "English"
!insertmacro MUI_LANGUAGE "German"
!insertmacro MUI_LANGUAGE "French"
!insertmacro MUI_LANGUAGE "Spanish"
!insertmacro MUI_LANGUAGE "Japanese"
!insertmacro MUI_LANGUAGE "SimpChinese"

!define CLASSES "Software\Classes"
!define UNINSTALL "Software\Microsoft\Windows\CurrentVersion\Uninstall\Rilievo"

; Offers the program for a kind of file, and leaves the program that opens it now.
!macro Offer EXTENSION
  WriteRegStr HKCU "${CLASSES}\${EXTENSION}\OpenWithProgids" "Rilievo.Document" ""
!macroend
!macro Withdraw EXTENSION
  DeleteRegValue HKCU "${CLASSES}\${EXTENSION}\OpenWithProgids" "Rilievo.Document"
!macroend

Section
  SetOutPath "$INSTDIR"
  File "/oname=rilievo.exe" "${BINARY}"
  File "/oname=rilievo-launcher.exe" "${LAUNCHER}"
  File "/oname=rilievo.ico" "${ICON}"
  File "/oname=LICENSE-MIT.txt" "${LICENSES}/LICENSE-MIT"
  File "/oname=LICENSE-APACHE.txt" "${LICENSES}/LICENSE-APACHE"
  CreateShortcut "$SMPROGRAMS\Rilievo.lnk" "$INSTDIR\rilievo-launcher.exe" "" "$INSTDIR\rilievo.ico"

  WriteRegStr HKCU "${CLASSES}\Rilievo.Document" "" "Rilievo document"
  WriteRegStr HKCU "${CLASSES}\Rilievo.Document\DefaultIcon" "" "$INSTDIR\rilievo.ico"
  WriteRegStr HKCU "${CLASSES}\Rilievo.Document\shell\open\command" "" '"$INSTDIR\rilievo-launcher.exe" "%1"'
  ; Only OpenRaster, which no other program of Windows opens, becomes ours by a double click.
  WriteRegStr HKCU "${CLASSES}\.ora" "" "Rilievo.Document"
  !insertmacro Offer ".ora"
  !insertmacro Offer ".psd"
  !insertmacro Offer ".kra"
  !insertmacro Offer ".png"
  !insertmacro Offer ".jpg"
  !insertmacro Offer ".webp"
  !insertmacro Offer ".tif"
  !insertmacro Offer ".exr"
  !insertmacro Offer ".svg"

  WriteRegStr HKCU "Software\Rilievo" "Folder" "$INSTDIR"
  WriteUninstaller "$INSTDIR\uninstall.exe"
  WriteRegStr HKCU "${UNINSTALL}" "DisplayName" "Rilievo"
  WriteRegStr HKCU "${UNINSTALL}" "DisplayVersion" "${VERSION}"
  WriteRegStr HKCU "${UNINSTALL}" "DisplayIcon" "$INSTDIR\rilievo.ico"
  WriteRegStr HKCU "${UNINSTALL}" "UninstallString" '"$INSTDIR\uninstall.exe"'
  WriteRegDWORD HKCU "${UNINSTALL}" "NoModify" 1
  WriteRegDWORD HKCU "${UNINSTALL}" "NoRepair" 1
SectionEnd

Section "Uninstall"
  Delete "$INSTDIR\rilievo.exe"
  Delete "$INSTDIR\rilievo-launcher.exe"
  Delete "$INSTDIR\rilievo.ico"
  Delete "$INSTDIR\LICENSE-MIT.txt"
  Delete "$INSTDIR\LICENSE-APACHE.txt"
  Delete "$INSTDIR\uninstall.exe"
  RMDir "$INSTDIR"
  Delete "$SMPROGRAMS\Rilievo.lnk"
  !insertmacro Withdraw ".ora"
  !insertmacro Withdraw ".psd"
  !insertmacro Withdraw ".kra"
  !insertmacro Withdraw ".png"
  !insertmacro Withdraw ".jpg"
  !insertmacro Withdraw ".webp"
  !insertmacro Withdraw ".tif"
  !insertmacro Withdraw ".exr"
  !insertmacro Withdraw ".svg"
  ReadRegStr $0 HKCU "${CLASSES}\.ora" ""
  StrCmp $0 "Rilievo.Document" 0 +2
    DeleteRegValue HKCU "${CLASSES}\.ora" ""
  DeleteRegKey HKCU "${CLASSES}\Rilievo.Document"
  DeleteRegKey HKCU "${UNINSTALL}"
  DeleteRegKey HKCU "Software\Rilievo"
SectionEnd
